foreach(name elastic_rod friction)
  filum_test(physics/${name})
endforeach()
