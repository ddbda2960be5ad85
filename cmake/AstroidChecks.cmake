# Checks of the sources themselves, as targets, so that the workflow presets run them: format-check and tidy.
add_custom_target(format-check
  COMMAND ${PROJECT_SOURCE_DIR}/cmake/format.sh --check
  COMMENT "clang-format: is every source formatted?" VERBATIM)
add_custom_target(tidy
  COMMAND ${PROJECT_SOURCE_DIR}/cmake/tidy.py
  COMMENT "clang-tidy over the tree" USES_TERMINAL VERBATIM)
