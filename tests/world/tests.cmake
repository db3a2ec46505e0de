foreach(name brain_scene cortex fixtures measured_model observe pull_test scene_file state_hash world)
  filum_test(world/${name})
endforeach()
