# The forceps' firmware under simavr. Without the compiler and the simulator one test says so and is skipped.
find_program(FILUM_AVR_GCC avr-gcc)
find_path(FILUM_SIMAVR_INCLUDE simavr/sim_avr.h)
find_library(FILUM_SIMAVR simavr)
find_library(FILUM_ELF elf)
if(FILUM_AVR_GCC AND FILUM_SIMAVR_INCLUDE AND FILUM_SIMAVR AND FILUM_ELF)
  set(firmware ${PROJECT_SOURCE_DIR}/hardware/forceps/firmware)
  set(protocol ${PROJECT_SOURCE_DIR}/hardware/protocol)
  set(elf ${CMAKE_CURRENT_BINARY_DIR}/forceps.elf)
  add_custom_command(OUTPUT ${elf}
    COMMAND make -s -C ${firmware} OUT=${CMAKE_CURRENT_BINARY_DIR} ${elf}
    DEPENDS ${firmware}/forceps.c ${firmware}/board.h ${firmware}/Makefile ${protocol}/filum_protocol.c ${protocol}/filum_protocol.h
    COMMENT "Building the forceps' firmware")
  add_custom_target(filum_forceps_firmware DEPENDS ${elf})
  add_library(filum_avr_board STATIC ${CMAKE_CURRENT_LIST_DIR}/avr_board.cpp)
  target_include_directories(filum_avr_board SYSTEM PRIVATE ${FILUM_SIMAVR_INCLUDE} ${FILUM_SIMAVR_INCLUDE}/simavr)
  target_link_libraries(filum_avr_board PRIVATE filum_options PUBLIC ${FILUM_SIMAVR} ${FILUM_ELF})
  foreach(name forceps_firmware latency)
    filum_test(firmware/${name} filum_devices filum_avr_board filum_haptics filum_world)
  endforeach()
  add_dependencies(firmware_tests filum_forceps_firmware)
  target_compile_definitions(firmware_tests PRIVATE FILUM_FIRMWARE_ELF="${elf}")
else()
  message(WARNING "avr-gcc, simavr or libelf are missing: the forceps' firmware is NOT tested")
  add_test(NAME firmware.NotTested COMMAND ${CMAKE_COMMAND} -E echo
    "SKIPPED: install gcc-avr avr-libc libsimavr-dev libelf-dev to test the forceps' firmware")
  set_tests_properties(firmware.NotTested PROPERTIES SKIP_REGULAR_EXPRESSION "SKIPPED")
endif()
