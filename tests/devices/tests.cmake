foreach(name monotone_cubic pose_track pose_script demonstrator)
  filum_test(devices/${name})
endforeach()
