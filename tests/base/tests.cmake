foreach(name block_cholesky ensure error exchange file_kind hash markup out_folder pose rng same_sums stage_clock tet_mesh units utc_stamp utf8 yaml_file)
  filum_test(base/${name} filum_base)
endforeach()
