foreach(name elastic_rod friction implicit_rod instrument linear_fem rod_contact rod_obstacle rod_resolution step_control spatula spatula_contact thread_grasp)
  filum_test(physics/${name})
endforeach()
filum_test(physics/pellet)
