foreach(name monotone_cubic pose_track pose_script demonstrator frame_reader)
  filum_test(devices/${name})
endforeach()
