# The rooms that mutate.py changes are compiled file by file: a mutant costs one file.
cmake_language(DEFER CALL set_target_properties tensegric_fit_tensegric tensegric_fit_tffd tensegric_fit_control_mesh
  tensegric_fit_landmarks PROPERTIES UNITY_BUILD OFF)
