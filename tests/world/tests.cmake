foreach(name brain_scene cortex fixtures observe pull_test scene_file state_hash world)
  filum_test(world/${name})
endforeach()
