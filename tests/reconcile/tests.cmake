foreach(name hereditary dataset rigs workflow)
  filum_test(reconcile/${name})
endforeach()
