foreach(name calibration_file calibration_fit calibration_guide clock_sync demonstrator forceps_calibration forceps_stream frame_reader hand_tremor haptic_link igtl_message igtl_stream igtl_tracker monotone_cubic pointer_device pose_script
             pose_track replay_device sample_check serial_forceps serial_port)
  filum_test(devices/${name})
endforeach()

filum_test(devices/igtl_library ${OpenIGTLink_LIBRARIES})
target_include_directories(devices_tests SYSTEM PRIVATE ${OpenIGTLink_INCLUDE_DIRS})

include(${CMAKE_CURRENT_LIST_DIR}/programs.cmake)

# What devices cost (no test: prints figures).
add_executable(filum_device_bench ${CMAKE_CURRENT_LIST_DIR}/device_bench.cpp)
target_link_libraries(filum_device_bench PRIVATE filum_devices)
