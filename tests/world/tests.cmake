foreach(name fixtures observe pull_test scene_file state_hash world)
  filum_test(world/${name})
endforeach()
