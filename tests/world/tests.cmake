foreach(name fixtures observe scene_file state_hash world)
  filum_test(world/${name})
endforeach()
