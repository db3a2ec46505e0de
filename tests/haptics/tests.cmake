foreach(name hand_coupling haptic_loop input_merge period_stats)
  filum_test(haptics/${name})
endforeach()
