# Devices for those who have none; other folders' tests use them, too.
include_guard(DIRECTORY)

# Forceps: plays a demonstration through a pty.
add_executable(filum_serial_feeder ${CMAKE_CURRENT_LIST_DIR}/serial_feeder.cpp)
target_link_libraries(filum_serial_feeder PRIVATE filum_devices)

# A haptic device: a simulated one that talks to the trainer by UDP.
add_executable(filum_haptic_client ${PROJECT_SOURCE_DIR}/hardware/haptic-link/reference_client.cpp)
target_link_libraries(filum_haptic_client PRIVATE filum_options filum_base filum_link)
