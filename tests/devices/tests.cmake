foreach(name clock_sync demonstrator forceps_calibration forceps_stream frame_reader hand_tremor monotone_cubic pointer_device pose_script
             pose_track replay_device sample_check serial_forceps)
  filum_test(devices/${name})
endforeach()
filum_fuzz(devices/forceps_calibration)
filum_fuzz(devices/frame_reader)
filum_fuzz(devices/pose_script)

# Forceps for those who have none: plays a demonstration through a pty.
add_executable(filum_serial_feeder ${CMAKE_CURRENT_LIST_DIR}/serial_feeder.cpp)
target_link_libraries(filum_serial_feeder PRIVATE filum_devices)
