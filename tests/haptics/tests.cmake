foreach(name hand_coupling haptic_link_loop haptic_loop input_merge local_contact period_stats scene_eyes)
  filum_test(haptics/${name})
endforeach()
filum_test(haptics/blade_feel filum_world)
