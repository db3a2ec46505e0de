foreach(name correlation grasp_force report scatter_plot spectrum tremor)
  filum_test(analysis/${name})
endforeach()
