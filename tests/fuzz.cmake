# Every reader of bytes that come from outside, and the fuzz target that tries it. A target reads what it says here and nothing is read by
# none; files of one layer that are told apart by their format line share a target.
# base: quantities; YAML as such; meshes
filum_fuzz(base/units filum_base)
filum_fuzz(base/yaml_file filum_base)
filum_fuzz(base/tet_mesh filum_base)
# devices: frames of the forceps; datagrams of the haptic link; OpenIGTLink; demonstrations; the forceps' calibration and its readings
filum_fuzz(devices/frame_reader filum_devices filum_protocol)
filum_fuzz(devices/haptic_link filum_devices filum_link)
filum_fuzz(devices/igtl_tracker filum_devices)
filum_fuzz(devices/pose_script filum_devices SEEDS curricula/*/demonstration.yaml)
filum_fuzz(devices/calibration_files filum_devices SEEDS models/forceps/*.yaml)
# tracker: a camera's calibration
if(TARGET filum_camera_model)
  filum_fuzz(tracker/camera_model filum_camera_model)
endif()
# anatomy: scans of heads
if(TARGET filum_nifti)
  filum_fuzz(anatomy/nifti_volume filum_nifti)
endif()
# world: sutures, instruments, needles, tracks, vessels, blades, brains, measured models; scenes
if(TARGET filum_scenes)
  filum_fuzz(world/model_file filum_scenes SEEDS models/suture/*.yaml models/instrument/*.yaml models/needle/*.yaml models/track/*.yaml models/vessel/*.yaml models/spatula/*.yaml)
  filum_fuzz(world/scene_file filum_scenes)
endif()
# training: courses, tasks, rules of lapses, rating scales, limits of pressure
if(TARGET filum_rules)
  filum_fuzz(training/rule_files filum_rules SEEDS curricula/course.yaml curricula/*/task.yaml curricula/research/*/task.yaml curricula/lapses/*.yaml curricula/scales/*.yaml models/brain/pressure-limits.yaml)
endif()
# session: recordings, their packed blocks, a store's index, its ratings
if(TARGET filum_records)
  filum_fuzz(session/stored_files filum_records)
endif()
# reconcile: tables and published tables to import; datasets and the model files that they name
if(TARGET filum_dataset)
  filum_fuzz(reconcile/csv_table filum_dataset)
  filum_fuzz(reconcile/dataset filum_dataset)
endif()
# server: messages of the browser, paths, names of hosts (HTTP and WebSocket themselves are Boost's)
if(TARGET filum_messages)
  filum_fuzz(server/client_message filum_messages)
endif()
# cli: what pages send (POST and PUT below /api), results in recordings
if(TARGET filum_requests)
  filum_fuzz(cli/requests filum_requests)
endif()
